// Generated from ComputeShaders/inverse_dwt.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const InverseDwt = {
  ...{"stage":"comp","entry":"InverseDwt","buffers":[{"name":"ll","binding":0,"read_only":true,"scalar":"uint","stride":4},{"name":"details","binding":1,"read_only":true,"scalar":"uint","stride":4},{"name":"rec_lo","binding":2,"read_only":true,"scalar":"float","stride":4},{"name":"rec_hi","binding":3,"read_only":true,"scalar":"float","stride":4},{"name":"fine","binding":7,"read_only":false,"scalar":"uint","stride":4}],"constants":[{"name":"static_offset_layout","offset":0,"scalar":"uint","shape":[3],"strides":[4],"used":false},{"name":"channels","offset":12,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"size","offset":16,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"taps","offset":20,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"factor","offset":24,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"reach","offset":28,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"delay","offset":32,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"texel_count","offset":36,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"first_row","offset":40,"scalar":"uint","shape":[],"strides":[],"used":false}],"constants_binding":9,"threads":[16,16,1]},
  code: `struct Constants{@align(16)static_offset_layout_0:vec3u,@align(4)channels_0:u32,@align(16)size_0:u32,@align(4)taps_0:u32,@align(8)factor_0:u32,@align(4)reach_0:u32,@align(16)delay_0:u32,@align(4)texel_count_0:u32,@align(8)first_row_0:u32,};
@binding(9)@group(0)var<uniform>Constants_0:Constants;
@binding(0)@group(0)var<storage,read>ll_0:array<u32>;
@binding(2)@group(0)var<storage,read>rec_lo_0:array<f32>;
@binding(1)@group(0)var<storage,read>details_0:array<u32>;
@binding(3)@group(0)var<storage,read>rec_hi_0:array<f32>;
@binding(7)@group(0)var<storage,read_write>fine_0:array<u32>;
fn rowCount_0()->u32{return 16u+Constants_0.taps_0/2u-1u;}
fn coarseRow_0(a:u32,b:u32)->u32{var c=(a*16u+b+Constants_0.taps_0*Constants_0.size_0-(Constants_0.taps_0/2u-1u))%Constants_0.size_0;return c;}
var<workgroup>filtered_0:array<vec2f,576>;
fn rowWords_0(a:u32)->u32{return(a+1u)/2u;}
fn halfAt_0(a:u32,b:u32)->f32{return unpack2x16float((a>>(16u*b))&65535u).x;}
fn olderSample_0(a:u32)->u32{var b:u32;if(a==0u){b=Constants_0.size_0;}else{b=a;}return b-1u;}
fn packHalves_0(a:vec2f)->u32{return pack2x16float(vec2f(a.x,0.0))|(pack2x16float(vec2f(a.y,0.0))<<16u);}
fn packBounded_0(a:vec2f)->u32{return packHalves_0(clamp(a,vec2f(-65504f),vec2f(65504f)));}
fn writeSquare_0(a:vec3u,b:vec4f){var c=(a.x>=Constants_0.size_0)||(a.y>=Constants_0.size_0);if(c){return;}var d=2u*Constants_0.size_0;var e=(vec2u(2u)*a.xy+vec2u(Constants_0.taps_0*Constants_0.size_0)-vec2u(Constants_0.taps_0/2u-1u))%vec2u(d);var f=(a.z*d+e.y)*Constants_0.size_0+e.x/2u;fine_0[f]=packBounded_0(b.xy);fine_0[f+Constants_0.size_0]=packBounded_0(b.zw);}
fn tapPair_0(a:u32)->vec2f{var b=2u*a;return vec2f(rec_lo_0[b],rec_lo_0[b+1u]);}
fn sampleAt_0(a:u32,b:u32)->f32{return halfAt_0(ll_0[a+b/2u],b&1u);}
fn filterRow_0(a:u32,b:u32,c:u32)->vec2f{var d=(a*Constants_0.size_0+b)*rowWords_0(Constants_0.size_0);var e=vec2f();var f=min(c,Constants_0.size_0-1u);var g=0u;var h=e;for(;g<(Constants_0.taps_0/2u);){var i=h+tapPair_0(g)*vec2f(sampleAt_0(d,f));var j=olderSample_0(f);var k=g+1u;f=j;g=k;h=i;}return h;}
fn tapPair_1(a:u32)->vec2f{var b=2u*a;return vec2f(rec_hi_0[b],rec_hi_0[b+1u]);}
fn sampleAt_1(a:u32,b:u32)->f32{return halfAt_0(details_0[a+b/2u],b&1u);}
fn filterRow_1(a:u32,b:u32,c:u32)->vec2f{var d=(a*Constants_0.size_0+b)*rowWords_0(Constants_0.size_0);var e=vec2f();var f=min(c,Constants_0.size_0-1u);var g=0u;var h=e;for(;g<(Constants_0.taps_0/2u);){var i=h+tapPair_1(g)*vec2f(sampleAt_1(d,f));var j=olderSample_0(f);var k=g+1u;f=j;g=k;h=i;}return h;}
fn filterColumns_0(a:vec2u)->vec4f{var b=a.y+Constants_0.taps_0/2u-1u;var c=vec4f();var d=0u;var e=c;for(;d<(Constants_0.taps_0/2u);){var f=e+tapPair_0(d).xxyy*filtered_0[(b-d)*16u+a.x].xyxy;d=d+1u;e=f;}return e;}
fn filterRow_2(a:u32,b:u32,c:u32)->vec2f{var d=(a*Constants_0.size_0+b)*rowWords_0(Constants_0.size_0);var e=vec2f();var f=min(c,Constants_0.size_0-1u);var g=0u;var h=e;for(;g<(Constants_0.taps_0/2u);){var i=h+tapPair_0(g)*vec2f(sampleAt_1(d,f));var j=olderSample_0(f);var k=g+1u;f=j;g=k;h=i;}return h;}
fn filterColumns_1(a:vec2u)->vec4f{var b=a.y+Constants_0.taps_0/2u-1u;var c=vec4f();var d=0u;var e=c;for(;d<(Constants_0.taps_0/2u);){var f=e+tapPair_1(d).xxyy*filtered_0[(b-d)*16u+a.x].xyxy;d=d+1u;e=f;}return e;}
@compute@workgroup_size(16,16,1)fn InverseDwt(@builtin(global_invocation_id)a:vec3u,@builtin(workgroup_id)b:vec3u,@builtin(local_invocation_id)c:vec3u){var d:u32;var e=c.y;var f=e;for(;;){var g=rowCount_0();d=g;if(f<g){}else{break;}var h=coarseRow_0(b.y,f);var i=a.z;var j=a.x;filtered_0[f*16u+c.x]=filterRow_0(i,h,j)+filterRow_1(Constants_0.channels_0+i,h,j);f=f+16u;}workgroupBarrier();var k=c.xy;var l=filterColumns_0(k);workgroupBarrier();f=e;for(;f<d;){var m=coarseRow_0(b.y,f);var n=a.z;var o=a.x;filtered_0[f*16u+c.x]=filterRow_2(n,m,o)+filterRow_1(2u*Constants_0.channels_0+n,m,o);f=f+16u;}workgroupBarrier();writeSquare_0(a,l+filterColumns_1(k));}`,
};

/** @type {import("../shader.js").Shader} */
export const UpsampleTexels = {
  ...{"stage":"comp","entry":"UpsampleTexels","buffers":[{"name":"ll","binding":0,"read_only":true,"scalar":"uint","stride":4},{"name":"upsampling","binding":4,"read_only":true,"scalar":"float","stride":4},{"name":"tiles","binding":5,"read_only":true,"scalar":"uint","stride":8},{"name":"static_offset","binding":6,"read_only":true,"scalar":"uint","stride":4},{"name":"texel_channels","binding":8,"read_only":false,"scalar":"uint","stride":8}],"constants":[{"name":"static_offset_layout","offset":0,"scalar":"uint","shape":[3],"strides":[4],"used":true},{"name":"channels","offset":12,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"size","offset":16,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"taps","offset":20,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"factor","offset":24,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"reach","offset":28,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"delay","offset":32,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"texel_count","offset":36,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"first_row","offset":40,"scalar":"uint","shape":[],"strides":[],"used":true}],"constants_binding":9,"threads":[16,16,1]},
  code: `struct Constants{@align(16)static_offset_layout_0:vec3u,@align(4)channels_0:u32,@align(16)size_0:u32,@align(4)taps_0:u32,@align(8)factor_0:u32,@align(4)reach_0:u32,@align(16)delay_0:u32,@align(4)texel_count_0:u32,@align(8)first_row_0:u32,};
@binding(9)@group(0)var<uniform>Constants_0:Constants;
@binding(5)@group(0)var<storage,read>tiles_0:array<vec2u>;
@binding(0)@group(0)var<storage,read>ll_0:array<u32>;
@binding(4)@group(0)var<storage,read>upsampling_0:array<f32>;
@binding(6)@group(0)var<storage,read>static_offset_0:array<u32>;
@binding(8)@group(0)var<storage,read_write>texel_channels_0:array<vec2u>;
fn cornerOf_0(a:u32)->vec2u{return vec2u(16u)*tiles_0[17*a];}
fn newestSample_0(a:u32)->u32{var b=(a+Constants_0.delay_0)/Constants_0.factor_0;return b;}
fn firstSample_0(a:u32)->u32{var b=newestSample_0(cornerOf_0(a).y);return b;}
var<workgroup>upsampled_0:array<vec4f,672>;
fn rowWords_0(a:u32)->u32{return(a+1u)/2u;}
fn phase_0(a:u32)->u32{var b=(a+Constants_0.delay_0)%Constants_0.factor_0;return b;}
fn halfAt_0(a:u32,b:u32)->f32{return unpack2x16float((a>>(16u*b))&65535u).x;}
fn olderSample_0(a:u32)->u32{var b:u32;if(a==0u){b=Constants_0.size_0;}else{b=a;}return b-1u;}
fn sampleAt_0(a:u32,b:u32)->f32{return halfAt_0(ll_0[a+b/2u],b&1u);}
fn upsampleRow_0(a:vec4u,b:u32,c:u32)->vec4f{var d=(a*vec4u(Constants_0.size_0)+vec4u(b))*vec4u(rowWords_0(Constants_0.size_0));var e=newestSample_0(c);var f=e%Constants_0.size_0;var g=phase_0(c);var h=vec4f();var i=f;var j=0u;var k=g;var l=h;for(;j<Constants_0.reach_0;){var m=l+vec4f(upsampling_0[k])*vec4f(sampleAt_0(d.x,i),sampleAt_0(d.y,i),sampleAt_0(d.z,i),sampleAt_0(d.w,i));var n=k+Constants_0.factor_0;var o=olderSample_0(i);var p=j+1u;i=o;j=p;k=n;l=m;}return l;}
fn loadBatch_0(a:u32,b:vec2u,c:u32){var d=min(vec4u(c)+vec4u(0u,1u,2u,3u),vec4u(Constants_0.channels_0-1u));var e=cornerOf_0(a);var f=firstSample_0(a);var g=newestSample_0(e.y+16u-1u);var h=g-f+Constants_0.reach_0;var i=b.y;for(;i<h;){var j=(f+i+Constants_0.reach_0*Constants_0.size_0-(Constants_0.reach_0-1u))%Constants_0.size_0;var k=b.x;var l=upsampleRow_0(d,j,e.x+k);upsampled_0[i*16u+k]=l;i=i+16u;}}
fn tileRow_0(a:u32,b:u32)->vec2u{return tiles_0[17*a+1u+b];}
fn isIn_0(a:u32,b:u32)->bool{return((a>>b)&1u)!=0u;}
fn texelOf_0(a:vec2u,b:u32)->u32{return a.x+countOneBits(a.y&((1u<<b)-1u));}
fn upsampleColumn_0(a:u32,b:u32,c:u32)->vec4f{var d=vec4f();var e=0u;var f=d;for(;e<Constants_0.reach_0;){var g=f+vec4f(upsampling_0[Constants_0.factor_0*e+b])*upsampled_0[(a-e)*16u+c];e=e+1u;f=g;}return f;}
fn batchAt_0(a:u32,b:vec2u)->vec4f{var c=cornerOf_0(a).y+b.y;var d=newestSample_0(c);var e=firstSample_0(a);var f=d-e+Constants_0.reach_0-1u;var g=phase_0(c);return upsampleColumn_0(f,g,b.x);}
fn byteAt_0(a:u32,b:u32)->i32{return i32(a<<(24u-8u*b))>>24u;}
fn stored_0(a:vec3u,b:u32)->f32{var c=a.x;var d=static_offset_0[b>>c];var e=b&((1u<<c)-1u);var f:f32;if(c==0u){f=bitcast<f32>(d|e);}else{if(c==1u){f=halfAt_0(d,e);}else{var g=f32(byteAt_0(d,e));var h=a.z;var i=b/a.y;f=g*(bitcast<f32>(static_offset_0[h+i]));}}return f;}
fn withStatic_0(a:vec4f,b:u32,c:u32)->vec4f{var d=vec4f();var e=0u;for(;e<4u;){var f=c+e;if(f<Constants_0.channels_0){var g=stored_0(Constants_0.static_offset_layout_0,f*Constants_0.texel_count_0+b);d[e]=a[e]+g;}e=e+1u;}return d;}
fn packHalves_0(a:vec2f)->u32{return pack2x16float(vec2f(a.x,0.0))|(pack2x16float(vec2f(a.y,0.0))<<16u);}
fn packBounded_0(a:vec2f)->u32{return packHalves_0(clamp(a,vec2f(-65504f),vec2f(65504f)));}
fn writeTexel_0(a:u32,b:u32,c:vec4f){texel_channels_0[b*Constants_0.texel_count_0+a]=vec2u(packBounded_0(c.xy),packBounded_0(c.zw));}
@compute@workgroup_size(16,16,1)fn UpsampleTexels(@builtin(workgroup_id)a:vec3u,@builtin(local_invocation_id)b:vec3u){var c=a.z;var d=4u*c;var e=a.x;var f=b.xy;loadBatch_0(e,f,d);workgroupBarrier();var g=tileRow_0(e,b.y);var h=b.x;if(!isIn_0(g.y,h)){return;}var i=texelOf_0(g,h);var j=Constants_0.first_row_0+c;var k=batchAt_0(e,f);var l=withStatic_0(k,i,d);writeTexel_0(i,j,l);}`,
};
