// Generated from python/mua/player/shaders/splat.hlsl by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const SplatVert = {
  ...{"stage":"vert","entry":"SplatVert","buffers":[{"name":"order","binding":0,"read_only":true,"scalar":"uint","stride":4},{"name":"splats","binding":1,"read_only":true,"scalar":"uint","stride":16}],"constants":[{"name":"view_projection","offset":0,"scalar":"float","shape":[4,4],"strides":[4,16],"used":true},{"name":"screen","offset":64,"scalar":"float","shape":[2],"strides":[4],"used":true},{"name":"eye","offset":72,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"corners","offset":76,"scalar":"uint","shape":[],"strides":[],"used":true}],"constants_binding":2,"threads":[1,1,1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0{@align(16)data_0:array<vec4f,4>,};
struct Constants{@align(16)view_projection_0:_MatrixStorage_float4x4_ColMajorstd140_0,@align(16)screen_0:vec2f,@align(8)eye_0:u32,@align(4)corners_0:u32,};
@binding(2)@group(0)var<uniform>Constants_0:Constants;
@binding(0)@group(0)var<storage,read>order_0:array<u32>;
@binding(1)@group(0)var<storage,read>splats_0:array<vec4u>;
fn colorScale_0(a:u32)->f32{return f32(1u<<a);}
fn unpackColor_0(a:vec2u,b:u32)->vec4f{var c=a.x;var d=a.y;var e=vec3f(vec3u((d>>11u),(d>>18u),(d>>25u))&vec3u(127u))-vec3f(64f);var f=vec3f(vec3u(c,(c>>10u),(c>>20u))&vec3u(1023u));var g:vec3f;if(b==0u){g=e;}else{g=vec3f(0)-e;}return vec4f(max(f+g,vec3f())*vec3f(colorScale_0(c>>30u)/1023f),f32(d&2047u)/2047f);}
fn halfAt_0(a:u32,b:u32)->f32{return unpack2x16float((a>>(16u*b))&65535u).x;}
fn unpackHalves_0(a:u32)->vec2f{return vec2f(halfAt_0(a,0u),halfAt_0(a,1u));}
fn splatWide_0(a:vec2f)->vec2f{return sqrt(a*a+vec2f(0.102621555f));}
fn splatCorner_0(a:u32,b:u32)->vec2f{var c=a==1u;var d=c||(a==2u);d=d||(a==4u);var e=a==2u;var f=e||(a==4u);f=f||(a==5u);var g:i32;if(b==3u){g=select(i32(-1),3i,c);var h=f32(g);g=select(i32(-1),3i,e);return vec2f(h,f32(g));}g=select(i32(-1),1i,d);var i=f32(g);g=select(i32(-1),1i,f);return vec2f(i,f32(g));}
fn splatOffset_0(a:vec2f,b:vec2f,c:vec2f)->vec2f{var d=b.y;return vec2f(2.015f)*(vec2f(d)*c+vec2f((b.x-d)*dot(a,c))*a);}
fn splatShare_0(a:vec2f,b:vec2f)->f32{return 0.8704669f*(a.x/b.x)*(a.y/b.y);}
struct SplatVaryings_0{@builtin(position)position_0:vec4f,@location(0)offset_0:vec2f,@interpolate(flat)@location(1)color_0:vec4f,};
fn splatVertex_0(a:u32,b:u32,c:u32,d:vec2f,e:mat4x4f)->SplatVaryings_0{var f:u32;if(b==3u){f=a/3u;}else{f=a/6u;}var g=2u*order_0[f];var h=splats_0[g];var i=splats_0[g+1u];var j=unpackColor_0(vec2u(h.w,i.x),c);var k:u32;if(c==0u){k=i.y;}else{k=i.z;}var l=unpackHalves_0(k);var m=length(l);var n=halfAt_0(i.w,c);var o=vec2f(m,n);var p=l/vec2f(max(m,1.1754944e-38f));var q=n>0f;var r:vec3f;if(q){r=bitcast<vec3f>(h.xyz);}else{r=vec3f();}var s=splatWide_0(o);var t=splatCorner_0(a-b*f,b);var u=vec4f(r,1f)*e;var v=u.w;var w=u.xy/vec2f(v)+splatOffset_0(p,s,t)*vec2f(2f,-2f)/d;var x=clamp(u.z/v,0f,1f);var y:SplatVaryings_0;y.position_0=vec4f(2f,2f,0f,1f);if(q){y.position_0=vec4f(w,x,1f);}y.offset_0=t;y.color_0=vec4f(j.xyz,j.w*splatShare_0(o,s));return y;}
@vertex fn SplatVert(@builtin(vertex_index)a:u32)->SplatVaryings_0{return splatVertex_0(a,Constants_0.corners_0,Constants_0.eye_0,Constants_0.screen_0,mat4x4f(Constants_0.view_projection_0.data_0[0][0],Constants_0.view_projection_0.data_0[1][0],Constants_0.view_projection_0.data_0[2][0],Constants_0.view_projection_0.data_0[3][0],Constants_0.view_projection_0.data_0[0][1],Constants_0.view_projection_0.data_0[1][1],Constants_0.view_projection_0.data_0[2][1],Constants_0.view_projection_0.data_0[3][1],Constants_0.view_projection_0.data_0[0][2],Constants_0.view_projection_0.data_0[1][2],Constants_0.view_projection_0.data_0[2][2],Constants_0.view_projection_0.data_0[3][2],Constants_0.view_projection_0.data_0[0][3],Constants_0.view_projection_0.data_0[1][3],Constants_0.view_projection_0.data_0[2][3],Constants_0.view_projection_0.data_0[3][3]));}`,
};

/** @type {import("../shader.js").Shader} */
export const CountFrag = {
  ...{"stage":"frag","entry":"CountFrag","buffers":[],"constants":[],"constants_binding":null,"threads":[1,1,1]},
  code: `struct pixelOutput_0{@location(0)output_0:vec4f,};
struct pixelInput_0{@location(0)offset_0:vec2f,@interpolate(flat)@location(1)color_0:vec4f,};
@fragment fn CountFrag(a:pixelInput_0,@builtin(position)b:vec4f)->pixelOutput_0{var c=pixelOutput_0(vec4f(1f,0f,0f,0f));return c;}`,
};

/** @type {import("../shader.js").Shader} */
export const SplatFrag = {
  ...{"stage":"frag","entry":"SplatFrag","buffers":[],"constants":[],"constants_binding":null,"threads":[1,1,1]},
  code: `struct SplatVaryings_0{position_0:vec4f,offset_0:vec2f,color_0:vec4f,};
fn splatFragment_0(a:SplatVaryings_0)->vec4f{var b=a.offset_0;var c=saturate(vec2f(1f)-b*b);var d=a.color_0.w*c.x*c.y;return vec4f(a.color_0.xyz*vec3f(d),d);}
struct pixelOutput_0{@location(0)output_0:vec4f,};
struct pixelInput_0{@location(0)offset_1:vec2f,@interpolate(flat)@location(1)color_1:vec4f,};
@fragment fn SplatFrag(a:pixelInput_0,@builtin(position)b:vec4f)->pixelOutput_0{var c=SplatVaryings_0(b,a.offset_1,a.color_1);var d=pixelOutput_0(splatFragment_0(c));return d;}`,
};
