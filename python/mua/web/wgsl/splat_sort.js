// Generated from ComputeShaders/splat_sort.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const CountDigits = {
  ...{"stage":"comp","entry":"CountDigits","buffers":[{"name":"keys","binding":0,"read_only":true,"scalar":"uint","stride":4},{"name":"digit_counts","binding":1,"read_only":false,"scalar":"uint","stride":4},{"name":"arguments","binding":3,"read_only":false,"scalar":"uint","stride":4}],"constants":[{"name":"second_pass","offset":0,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"key_count","offset":4,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"instances","offset":8,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"corners","offset":12,"scalar":"uint","shape":[],"strides":[],"used":false}],"constants_binding":5,"threads":[256,1,1]},
  code: `struct Constants{@align(16)second_pass_0:u32,@align(4)key_count_0:u32,@align(8)instances_0:u32,@align(4)corners_0:u32,};
@binding(5)@group(0)var<uniform>Constants_0:Constants;
@binding(3)@group(0)var<storage,read_write>arguments_0:array<u32>;
@binding(0)@group(0)var<storage,read>keys_0:array<u32>;
@binding(1)@group(0)var<storage,read_write>digit_counts_0:array<u32>;
fn elementCount_0()->u32{var a:u32;if(Constants_0.second_pass_0!=0u){a=arguments_0[4];}else{a=Constants_0.key_count_0;}return a;}
fn wordOf_0(a:u32,b:u32)->u32{var c:u32;if(a==65535u){c=4294967295u;}else{c=(((a&255u)<<24u)|((a>>8u)<<11u))|b;}return c;}
fn loadWords_0(a:u32,b:u32,c:ptr<function,array<u32,8>>){var d=elementCount_0();var e=8u*a;var f:u32;var g:u32;if(Constants_0.second_pass_0!=0u){f=0u;for(;f<8u;){var h=b+e+f;if(h<d){g=keys_0[h];}else{g=4294967295u;}(*c)[f]=g;f=f+1u;}}else{f=0u;for(;f<8u;){var i=b+e+f;if(i<d){g=keys_0[i/2u];}else{g=4294967295u;}var j=e+f;(*c)[f]=wordOf_0(g&65535u,j);var k:u32;if((i+1u)<d){k=g>>16u;}else{k=65535u;}(*c)[f+1u]=wordOf_0(k,j+1u);f=f+2u;}}}
var<workgroup>histogram_0:array<atomic<u32>,256>;
fn groupCount_0()->u32{return(elementCount_0()+2048u-1u)/2048u;}
@compute@workgroup_size(256,1,1)fn CountDigits(@builtin(local_invocation_index)a:u32,@builtin(workgroup_id)b:vec3u){var c=b.x;var d:array<u32,8>;loadWords_0(a,c*2048u,&d);atomicStore(&histogram_0[a],0u);workgroupBarrier();var e=0u;for(;e<8u;){if(d[e]!=4294967295u){var f=atomicAdd(&histogram_0[d[e]>>24u],1u);}e=e+1u;}workgroupBarrier();if(c<groupCount_0()){var g=atomicLoad(&histogram_0[a]);digit_counts_0[a*groupCount_0()+c]=g;}}`,
};

/** @type {import("../shader.js").Shader} */
export const ScanDigits = {
  ...{"stage":"comp","entry":"ScanDigits","buffers":[{"name":"digit_counts","binding":1,"read_only":false,"scalar":"uint","stride":4},{"name":"digit_totals","binding":2,"read_only":false,"scalar":"uint","stride":4},{"name":"arguments","binding":3,"read_only":false,"scalar":"uint","stride":4}],"constants":[{"name":"second_pass","offset":0,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"key_count","offset":4,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"instances","offset":8,"scalar":"uint","shape":[],"strides":[],"used":false},{"name":"corners","offset":12,"scalar":"uint","shape":[],"strides":[],"used":false}],"constants_binding":5,"threads":[256,1,1]},
  code: `struct Constants{@align(16)second_pass_0:u32,@align(4)key_count_0:u32,@align(8)instances_0:u32,@align(4)corners_0:u32,};
@binding(5)@group(0)var<uniform>Constants_0:Constants;
@binding(3)@group(0)var<storage,read_write>arguments_0:array<u32>;
@binding(1)@group(0)var<storage,read_write>digit_counts_0:array<u32>;
@binding(2)@group(0)var<storage,read_write>digit_totals_0:array<u32>;
fn elementCount_0()->u32{var a:u32;if(Constants_0.second_pass_0!=0u){a=arguments_0[4];}else{a=Constants_0.key_count_0;}return a;}
fn groupCount_0()->u32{return(elementCount_0()+2048u-1u)/2048u;}
var<workgroup>sums_0:array<u32,256>;
@compute@workgroup_size(256,1,1)fn ScanDigits(@builtin(local_invocation_index)a:u32,@builtin(workgroup_id)b:vec3u){var c=groupCount_0();var d=(c+16u-1u)/16u;var e=16u*b.x+a/16u;var f=e*c;var g=a%16u;var h=min(g*d,c);var i=min(h+d,c);var j=h;var k=0u;for(;j<i;){var l=k+digit_counts_0[f+j];j=j+1u;k=l;}sums_0[a]=k;workgroupBarrier();j=a-g;var m=0u;for(;j<a;){var n=m+sums_0[j];j=j+1u;m=n;}if(g==15u){digit_totals_0[e]=m+k;}j=h;for(;j<i;){var o=f+j;var p=digit_counts_0[o];digit_counts_0[o]=m;var q=m+p;j=j+1u;m=q;}}`,
};

/** @type {import("../shader.js").Shader} */
export const ScatterDigits = {
  ...{"stage":"comp","entry":"ScatterDigits","buffers":[{"name":"keys","binding":0,"read_only":true,"scalar":"uint","stride":4},{"name":"digit_counts","binding":1,"read_only":false,"scalar":"uint","stride":4},{"name":"digit_totals","binding":2,"read_only":false,"scalar":"uint","stride":4},{"name":"arguments","binding":3,"read_only":false,"scalar":"uint","stride":4},{"name":"sorted","binding":4,"read_only":false,"scalar":"uint","stride":4}],"constants":[{"name":"second_pass","offset":0,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"key_count","offset":4,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"instances","offset":8,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"corners","offset":12,"scalar":"uint","shape":[],"strides":[],"used":true}],"constants_binding":5,"threads":[256,1,1]},
  code: `struct Constants{@align(16)second_pass_0:u32,@align(4)key_count_0:u32,@align(8)instances_0:u32,@align(4)corners_0:u32,};
@binding(5)@group(0)var<uniform>Constants_0:Constants;
@binding(3)@group(0)var<storage,read_write>arguments_0:array<u32>;
@binding(0)@group(0)var<storage,read>keys_0:array<u32>;
@binding(2)@group(0)var<storage,read_write>digit_totals_0:array<u32>;
@binding(1)@group(0)var<storage,read_write>digit_counts_0:array<u32>;
@binding(4)@group(0)var<storage,read_write>sorted_0:array<u32>;
fn elementCount_0()->u32{var a:u32;if(Constants_0.second_pass_0!=0u){a=arguments_0[4];}else{a=Constants_0.key_count_0;}return a;}
fn wordOf_0(a:u32,b:u32)->u32{var c:u32;if(a==65535u){c=4294967295u;}else{c=(((a&255u)<<24u)|((a>>8u)<<11u))|b;}return c;}
fn loadWords_0(a:u32,b:u32,c:ptr<function,array<u32,8>>){var d=elementCount_0();var e=8u*a;var f:u32;var g:u32;if(Constants_0.second_pass_0!=0u){f=0u;for(;f<8u;){var h=b+e+f;if(h<d){g=keys_0[h];}else{g=4294967295u;}(*c)[f]=g;f=f+1u;}}else{f=0u;for(;f<8u;){var i=b+e+f;if(i<d){g=keys_0[i/2u];}else{g=4294967295u;}var j=e+f;(*c)[f]=wordOf_0(g&65535u,j);var k:u32;if((i+1u)<d){k=g>>16u;}else{k=65535u;}(*c)[f+1u]=wordOf_0(k,j+1u);f=f+2u;}}}
fn scanPlace_0(a:u32)->u32{return a+a/16u;}
var<workgroup>words_0:array<u32,2048>;
fn writeCounters_0(a:u32,b:vec4u){var c=0u;for(;c<4u;){words_0[272*c+a]=b[c];c=c+1u;}}
fn counterBytes_0(a:vec2u)->vec4u{var b=a.x;var c=a.y;return vec4u(b,(b>>4u),c,(c>>4u))&vec4u(252645135u);}
fn readCounters_0(a:u32)->vec4u{var b=vec4u();var c=0u;for(;c<4u;){b[c]=words_0[272*c+a];c=c+1u;}return b;}
fn scanRows_0(a:u32,b:vec2u)->vec4u{var c=scanPlace_0(a);var d=0u;for(;d<2u;){words_0[272*d+c]=b[d];d=d+1u;}workgroupBarrier();var e=a<16u;d=select(0u,16u,e);var f=vec4u();var g=17u*a;var h=0u;var i=g;var j=f;for(;h<d;){var k=vec2u();var l=0u;for(;l<2u;){k[l]=words_0[272*l+i];l=l+1u;}writeCounters_0(i,j);var m=j+counterBytes_0(k);var n=i+1u;h=h+1u;i=n;j=m;}if(e){writeCounters_0(i,j);}workgroupBarrier();return readCounters_0(c);}
fn rowCounter_0(a:u32,b:u32)->u32{var c=b&1u;var d=select(2i,0i,(b<8u));return(words_0[272*(c+u32(d))+17u*a+16u]>>(4u*(b&6u)))&255u;}
var<workgroup>scanned_0:array<u32,272>;
var<workgroup>rowStarts_0:array<u32,16>;
var<workgroup>scanTotal_0:u32;
fn exclusiveScan_0(a:u32,b:u32,c:ptr<function,u32>)->u32{scanned_0[scanPlace_0(a)]=b;workgroupBarrier();var d=a<16u;var e=select(0i,16i,d);var f=u32(e);var g=0u;var h=0u;for(;g<f;){var i=scanned_0[17*a+g];scanned_0[17*a+g]=h;var j=h+i;g=g+1u;h=j;}if(d){rowStarts_0[a]=h;}workgroupBarrier();var k=a==0u;e=select(0i,16i,k);var l=u32(e);g=0u;h=0u;for(;g<l;){var m=rowStarts_0[g];rowStarts_0[g]=h;var n=h+m;g=g+1u;h=n;}if(k){scanTotal_0=h;}workgroupBarrier();(*c)=scanTotal_0;return scanned_0[scanPlace_0(a)]+rowStarts_0[a/16u];}
fn exclusiveScan_1(a:u32,b:u32,c:ptr<function,u32>)->u32{scanned_0[scanPlace_0(a)]=b;workgroupBarrier();var d=a<16u;var e=select(0i,16i,d);var f=u32(e);var g=0u;var h=0u;for(;g<f;){var i=scanned_0[17*a+g];scanned_0[17*a+g]=h;var j=h+i;g=g+1u;h=j;}if(d){rowStarts_0[a]=h;}workgroupBarrier();var k=a==0u;e=select(0i,16i,k);var l=u32(e);g=0u;h=0u;for(;g<l;){var m=rowStarts_0[g];rowStarts_0[g]=h;var n=h+m;g=g+1u;h=n;}if(k){scanTotal_0=h;}workgroupBarrier();(*c)=scanTotal_0;return scanned_0[scanPlace_0(a)]+rowStarts_0[a/16u];}
fn binByte_0(a:vec4u,b:u32)->u32{var c:vec2u;if(b<8u){c=a.xy;}else{c=a.zw;}var d:u32;if((b&1u)!=0u){d=c.y;}else{d=c.x;}return(d>>(4u*(b&6u)))&255u;}
fn splitWords_0(a:u32,b:array<u32,8>,c:u32)->u32{var d=vec2u();var e:array<u32,8>;var f=0u;var g=d;for(;f<8u;){var h=(b[f]>>c)&15u;var i=4u*(h&7u);var j:u32;if(b[f]!=4294967295u){j=1u<<i;}else{j=0u;}var k=h<8u;var l:u32;if(k){l=g.x;}else{l=g.y;}e[f]=(l>>i)&15u;var m:vec2u;if(k){m=vec2u(j,0u);}else{m=vec2u(0u,j);}var n=g+m;f=f+1u;g=n;}var o=scanRows_0(a,g);var p:u32;var q=exclusiveScan_0(a,rowCounter_0(a%16u,a/16u),&p);scanned_0[scanPlace_0(a)]=q;workgroupBarrier();f=0u;for(;f<8u;){var r=f;var s=(b[f]>>c)&15u;if(b[f]!=4294967295u){words_0[scanned_0[17*s+a/16u]+binByte_0(o,s)+e[f]]=b[r];}f=f+1u;}workgroupBarrier();return p;}
fn orderBlock_0(a:u32,b:u32)->u32{var c:array<u32,8>;loadWords_0(a,b,&c);var d=splitWords_0(a,c,24u);var e=0u;for(;e<8u;){var f=8u*a+e;var g:u32;if(f<d){g=words_0[f];}else{g=4294967295u;}c[e]=g;e=e+1u;}workgroupBarrier();var h=splitWords_0(a,c,28u);return h;}
fn groupCount_0()->u32{return(elementCount_0()+2048u-1u)/2048u;}
fn placeDigits_0(a:u32,b:u32,c:u32)->u32{var d=digit_totals_0[a];var e:u32;var f:u32;if(b<c){var g=a*c+b;var h=digit_counts_0[g];if((b+1u)<c){e=digit_counts_0[g+1u];}else{e=d;}e=e-h;f=h;}else{e=0u;f=0u;}var i:u32;var j=exclusiveScan_1(a,d-e,&i);scanned_0[scanPlace_0(a)]=j+f;workgroupBarrier();return i;}
fn writeArguments_0(a:u32){arguments_0[0]=Constants_0.corners_0*a;arguments_0[1]=Constants_0.instances_0;arguments_0[2]=0u;arguments_0[3]=0u;arguments_0[4]=a;}
fn sortedElement_0(a:u32,b:u32)->u32{var c=(((a>>11u)&255u)<<24u)|(b+(a&2047u));var d:u32;if(Constants_0.second_pass_0!=0u){d=a&16777215u;}else{d=c;}return d;}
@compute@workgroup_size(256,1,1)fn ScatterDigits(@builtin(local_invocation_index)a:u32,@builtin(workgroup_id)b:vec3u){var c=b.x;var d=c*2048u;var e=orderBlock_0(a,d);var f=placeDigits_0(a,c,groupCount_0());var g=(Constants_0.second_pass_0==0u)&&(c==0u);g=g&&(a==0u);if(g){writeArguments_0(f+e);}var h=a;for(;h<e;){sorted_0[scanned_0[scanPlace_0(words_0[h]>>24u)]+h]=sortedElement_0(words_0[h],d);h=h+256u;}}`,
};
